"""A class of 65 repositories, written as students submit them."""
