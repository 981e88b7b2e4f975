"""What people typed: the folder of a gradebook, marks, imported marks."""
