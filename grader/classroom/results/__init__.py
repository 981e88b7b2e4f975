"""What grading a class found: the results of all runs, and equal work."""
