"""The thesis's results from recipes: solved, drawn, measured, tabulated."""
