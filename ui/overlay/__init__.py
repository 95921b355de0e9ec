"""What the 3D viewport shows of a motion and of what is asked for.

Each redraw: `seen` reads what is there, `picture` names the layers that shall be drawn by their
content, `pictures` keeps what was built for the same content, and `drawn` hands it to the graphics
card. Shapes are arrays (`shapes`, `solids`, `arcs`, `figure`) and know nothing of Blender.
"""
