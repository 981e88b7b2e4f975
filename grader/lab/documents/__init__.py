"""Written answers and evidence: Markdown, text, Word and PDF files, pictures.

It imports `files`; a Word or PDF file is read in a process of its own, `converter.py`. Begin with
`collection.py`, then `answers.py` and `evidence.py`.
"""
