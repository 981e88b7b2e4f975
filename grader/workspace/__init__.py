"""Names that the files of a workspace define and use, and whether they agree.

Readers yield what each file defines and uses; `names.py` joins them. They know ROS 2 and well-known
packages.
"""
