"""The only place that converts between Blender's data and the solver's."""
