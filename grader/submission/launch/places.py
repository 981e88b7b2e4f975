"""Stand-ins for folders that only a machine knows, and how launch files are named."""

# Paths below these are compared as texts.
PREFIX = "/<prefix>"  # where a build installs to
WORKING_FOLDER = "/<current folder>"
HOME = "/<home>"
SHARE = f"{PREFIX}/share"

ENDINGS = (".launch.py", ".launch.xml", ".launch.yaml", ".launch.yml", "_launch.py", "_launch.xml", "_launch.yaml")
