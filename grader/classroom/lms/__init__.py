"""Files of learning management systems: a gradebook filled with the grades, and feedback for the
students.
"""
