"""Test a rubric: mutants of its reference must lose points, equivalents nothing, samples what they declare."""
