"""Between stored rows and the solver's records: constraints, contacts, body changes."""
