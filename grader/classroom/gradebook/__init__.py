"""The gradebook: its tables, the grades, the marks and the statistics made from them."""
