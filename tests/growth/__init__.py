"""How the time of searching grows with the text."""
