"""Clean recordings damaged in known ways, diagnosed and repaired (docs/doctor.md)."""
