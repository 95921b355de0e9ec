"""The hostile campaign: damaged files, random requests, abused processes and sessions."""
