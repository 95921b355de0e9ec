"""Running a batch on this machine: worker processes, their memory, what is told meanwhile."""
