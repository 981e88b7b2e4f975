"""The submissions of a class: layouts of folders and downloads, the roster, and whose each submission is."""
