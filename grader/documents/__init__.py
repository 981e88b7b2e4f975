"""Written answers and evidence: Markdown, text, docx, PDF and pictures."""
