"""The files that stand in the root of an autograder for Gradescope. They run there, and nothing here imports them."""
