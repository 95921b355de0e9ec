"""The worker process: protocol, service, progress."""
