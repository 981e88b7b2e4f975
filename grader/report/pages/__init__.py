"""Reports as pages for a browser: self-contained HTML, made from templates that escape all text."""
