from glob import glob

from setuptools import setup

setup(
    name="rover",
    data_files=[
        ("share/rover", ["package.xml"]),
        ("share/rover/urdf", glob("urdf/*")),
        ("share/rover/meshes", glob("meshes/*")),
    ],
)
