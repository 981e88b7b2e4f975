"""What runs after a launch: nodes, and the topics, services and transforms that they open."""
