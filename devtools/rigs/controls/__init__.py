"""Rigs that are posed through controls: do their bones end where the solution has them?"""
