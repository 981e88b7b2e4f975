"""A class of 60 repositories, written as students hand them in."""
