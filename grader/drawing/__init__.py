"""The content of pictures of a robot: shapes, frames, driving directions of wheels, failed criteria."""
