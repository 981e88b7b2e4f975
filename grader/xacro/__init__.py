"""xacro text to URDF text, without running anything."""
