"""A report in one format each. Renderers lay out what was found; they never grade."""
