"""The commands: parse arguments, call one function of a lower floor, print, exit."""
