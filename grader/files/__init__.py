"""Read untrusted files: folders, archives and limits. No other package opens a student's file."""
