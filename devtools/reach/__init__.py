"""How the body shares a reach, joint by joint."""
