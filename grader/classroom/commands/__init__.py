"""What the commands for a class do, without printing."""
