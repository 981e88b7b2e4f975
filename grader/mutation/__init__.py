"""Test a rubric: mutants of its reference must lose something, equivalents of it nothing, samples what they declare."""
