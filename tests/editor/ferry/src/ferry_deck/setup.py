from setuptools import setup

setup(
    name="ferry_deck",
    version="1.0.0",
    packages=["ferry_deck"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/ferry_deck"]),
        ("share/ferry_deck", ["package.xml"]),
        ("share/ferry_deck/config", ["config/deck.yaml"]),
    ],
    install_requires=["setuptools"],
    entry_points={
        "console_scripts": [
            "scale = ferry_deck.scale:main",
            "pilot = ferry_deck.pilot:main",
        ],
    },
)
