"""Mesh files as triangles, for pictures: no criterion reads them. Import it late: it loads numpy.

Begin with `triangles.py`.
"""
