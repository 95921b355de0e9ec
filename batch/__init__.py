"""Many clips with many recipes: planned, solved cell by cell, collected; no Blender is loaded."""
