"""The terminal: what it shows of a job, and what it does not."""
