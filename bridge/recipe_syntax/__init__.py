"""Reading and writing the tables of a recipe: keys, values, complaints at their line."""
