"""Overlays of the 3D viewport: a motion, and what is asked of it.

Each redraw: `context` reads what is there. Where that has changed, `layer_selection` names the
layers that shall be drawn by their content, `picture_cache` keeps what was built for the same
content, and `gpu_batches` hands it to the graphics card. Shapes are arrays (`geometry`) and know
nothing of Blender's data.
"""
