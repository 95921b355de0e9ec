"""Handles in the 3D viewport: contacts and points to be dragged, stances turned, limits opened.

They sit on what ui/overlay draws and start operators; `places` says where, without Blender's
gizmos.
"""
