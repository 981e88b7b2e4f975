"""Classes of submissions: intake, parallel runs, the gradebook, and files of learning management systems."""
