"""The articulated rigid-body model: anatomy, mass, kinematics, dynamics, human limits."""
