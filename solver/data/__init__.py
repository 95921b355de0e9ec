"""Plain records shared by all layers: recordings, contacts, requests, problems, faults."""
