"""What pictures show of a robot: shapes and frames by forward kinematics, the way its wheels drive, where criteria failed."""
