"""A report in each of its formats. Renderers lay it out; they never grade."""
