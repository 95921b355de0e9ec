"""A motion as finitely many unknowns: constraints, objectives and costs with Jacobians."""
