"""Results of a motion: report, violations, traces, torque curves, exports for checking."""
