"""The fit: the physically valid motion nearest to a recording, which every stage begins with."""
