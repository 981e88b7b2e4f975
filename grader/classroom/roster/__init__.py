"""Who is in a class: the roster, deadlines, typed names."""
