"""Show a class: in a terminal, as JSON, as a page."""
