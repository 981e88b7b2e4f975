"""The layouts of a class folder or zip. Each reads the submissions from names; none opens a submission."""
