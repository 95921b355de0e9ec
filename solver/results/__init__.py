"""What is told of a motion: report, violations, traces, torques, exports for checking."""
