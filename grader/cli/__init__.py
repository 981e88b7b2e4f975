"""The commands: parse arguments, call one use case, print, exit."""
