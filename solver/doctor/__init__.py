"""What is wrong with a recording before it is fitted, and its repairs: pure functions of it."""
