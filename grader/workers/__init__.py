"""Tasks in other processes: an executor whose tasks always end, a queue, and progress. Independent of classes."""
