"""How robots stand and drive: designs that are correct or have one fault."""
