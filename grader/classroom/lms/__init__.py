"""Files of learning management systems.

These are a gradebook filled with the grades, and feedback for the students.
"""
