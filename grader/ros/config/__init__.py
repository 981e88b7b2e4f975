"""Configuration of nodes and of RViz: YAML files, each value with its place."""
