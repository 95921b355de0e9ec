"""The performer as a tree of rigid bodies: anatomy, kinematics, dynamics, human limits."""
