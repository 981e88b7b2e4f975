"""The ways in which a class's submissions lie in a folder or zip. Each turns names into hand-ins; none opens a submission."""
