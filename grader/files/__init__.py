"""Read untrusted files: folders, archives and limits. Nothing else opens a student's file."""
