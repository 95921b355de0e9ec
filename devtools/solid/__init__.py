"""Whether anything goes through the floor, the scene or itself, and whether joints stay joints."""
