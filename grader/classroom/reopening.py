"""Open a graded submission again, to quote its files, show its answers and search its hints."""

from grader.classroom.graded import Graded, digest_of
from grader.classroom.grades import Class
from grader.classroom.opening import open_class_submission
from grader.errors import InputError
from grader.submission.submission import Opening, Submission


def reopened(book: Class, graded: Graded) -> Submission | None:
    """Return a submission as it was graded; None if it has moved or changed since, or cannot be read."""
    roots = book.settings.roots(book.folder)
    if graded.root >= len(roots) or not graded.paths:
        return None
    root = str(roots[graded.root].resolve())
    try:
        opened = open_class_submission(root, graded.paths, graded.names, graded.student, book.settings.max_size)
        if digest_of(opened.digest) != graded.digest:
            return None
        known = book.results.texts(graded)
        options = Opening(0, book.settings.arguments, graded.no_documents, converted=known)
        return opened.submission(book.rubric, options)
    except InputError:
        return None
