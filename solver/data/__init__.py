"""Plain data that everything else is stated in: recordings, contacts, problems, faults."""
