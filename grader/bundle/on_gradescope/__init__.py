"""The files in the root of an autograder for Gradescope. They run there; nothing here imports them."""
