"""Tasks in other processes: an executor whose tasks always end, a queue, and progress.

It knows nothing of classes or grading. Begin with `pool.py`.
"""
