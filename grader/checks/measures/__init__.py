"""What checks would measure on a reference solution: facts for a new rubric. Imported by `rubric new` only."""
