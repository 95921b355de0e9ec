"""Control rigs: bodies that follow other bones, posed through the controls that move them."""
