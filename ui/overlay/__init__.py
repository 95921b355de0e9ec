"""What the 3D viewport shows of a motion and of what is asked for.

Each redraw: `seen` reads what is there, `layers` names what shall be drawn by its content, `cache`
keeps what was built for the same content, and `drawn` hands it to the graphics card. Shapes are
arrays (`shapes`, `solids`, `arcs`, `figure`) and know nothing of Blender.
"""
