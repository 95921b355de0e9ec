"""What is solid: the body's shapes, the floor, and how deep one is in another."""
