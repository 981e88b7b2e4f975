"""Small inputs that ask for far more work than their size: each is a way to multiply."""
