"""An adaptation's problem as other solvers take it, and IPOPT's solution of it."""
