"""Tasks in other processes: an executor whose tasks end in any case, a queue, and how far it is. Knows no class."""
