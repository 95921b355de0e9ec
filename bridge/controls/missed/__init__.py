"""How far a result is from its solution, by what poses bones beside their keys or controls."""
