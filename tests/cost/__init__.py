"""What the commands cost in modules and instructions, which are the same on every machine."""
