"""What a class has handed in: the layouts of folders and downloads, the roster, whose each hand-in is."""
