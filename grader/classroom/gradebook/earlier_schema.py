"""The steps to the earlier versions of a gradebook. They were released and never change."""

# What protects the manual marks, and the views on the tables below, whose names have changed with version 4.
_PROTECTION = """
CREATE TRIGGER mark_stays BEFORE DELETE ON mark
BEGIN SELECT raise(ABORT, 'a manual mark is never deleted'); END;
CREATE TRIGGER mark_unchanged BEFORE UPDATE ON mark
BEGIN SELECT raise(ABORT, 'a manual mark is never changed: add another'); END;
CREATE TRIGGER mark_not_replaced BEFORE INSERT ON mark WHEN EXISTS (SELECT 1 FROM mark WHERE id = new.id)
BEGIN SELECT raise(ABORT, 'a manual mark is never changed: add another'); END;
"""
_VIEWS = """
-- The manual marks that count: the newest of each student and criterion, unless it takes the mark back.
CREATE VIEW {manual_mark} AS
SELECT * FROM mark WHERE points IS NOT NULL
AND id = (SELECT max(id) FROM mark AS newer WHERE newer.student = mark.student AND newer.criterion = mark.criterion);

-- What the manual marks change in each student's newest result. CROSS JOIN makes SQLite start from the few marks. A mark is
-- older where it was given for another submission, or when the criterion had another maximum.
CREATE VIEW {override} AS
SELECT student,
    count(*) AS marks,
    sum(points - iif(status {has_points}, maximum, 0)) AS score,
    sum(iif(status = '-', maximum, 0)) AS out_of,
    sum(iif(status = '?', maximum, 0)) AS pending,
    sum(status = '!') AS faults,
    sum(is_older) AS older, sum(points > maximum) AS over
FROM (
    SELECT {manual_mark}.student, {manual_mark}.points, criterion.points AS maximum,
        substr(result.{statuses}, criterion.position + 1, 1) AS status,
        marked.id <> result.id AND (
            marked.digest = '' OR marked.digest <> result.digest OR before.points IS NOT criterion.points
        ) AS is_older
    FROM {manual_mark}
    CROSS JOIN result AS marked ON marked.id = {manual_mark}.result
    LEFT JOIN criterion AS before ON before.rubric = marked.rubric AND before.id = {manual_mark}.criterion
    CROSS JOIN {submission} ON {submission}.student = {manual_mark}.student
        AND {submission}.run = (SELECT max(run) FROM {submission} AS newer WHERE newer.student = {manual_mark}.student)
    CROSS JOIN result ON result.id = {submission}.result
    CROSS JOIN criterion ON criterion.rubric = result.rubric AND criterion.id = {manual_mark}.criterion
)
GROUP BY student;

-- The current grade of every student: the automatic points with the manual marks.
CREATE VIEW grade AS
SELECT student.*, {submission}.run, {submission}.result, result.rubric, result.version, result.digest,
    coalesce(result.verdict, 'missing') AS verdict, coalesce(result.reason, '') AS reason,
    result.score + coalesce({override}.score, 0) AS score,
    result.out_of + coalesce({override}.out_of, 0) AS out_of,
    result.pending - coalesce({override}.pending, 0) AS pending,
    length({statuses}) - length(replace({statuses}, '!', '')) - coalesce({override}.faults, 0) AS faults,
    coalesce({override}.marks, 0) AS marks, coalesce({override}.older, 0) AS older_marks,
    coalesce({override}.over, 0) AS over_marks,
    coalesce({submission}.is_gone, 0) AS is_gone,
    result.{statuses}, coalesce(result.{failures}, '[]') AS {failures},{columns}
    coalesce({submission}.{files}, '[[], [], 0, []]') AS {files}, {submission}.fingerprint,
    coalesce({submission}.is_late, 0) AS is_late, coalesce({submission}.submitted, '') AS submitted,
    run.source
FROM student
LEFT JOIN {submission} ON {submission}.student = student.id
    AND {submission}.run = (SELECT max(run) FROM {submission} AS newer WHERE newer.student = student.id)
LEFT JOIN result ON result.id = {submission}.result
LEFT JOIN run ON run.id = {submission}.run
LEFT JOIN {override} ON {override}.student = student.id;
"""
_FIRST_NAMES = {
    "manual_mark": "ruling",
    "override": "ruled",
    "submission": "seen",
    "files": "place",
    "statuses": "signs",
    "failures": "misses",
}
_OF_EARLIER_VERSIONS = {"has_points": "= 'p'", "columns": ""}

_FIRST = (
    """
CREATE TABLE rubric (
    sha256 TEXT PRIMARY KEY,
    id TEXT NOT NULL,
    title TEXT NOT NULL,
    path TEXT NOT NULL,
    text BLOB NOT NULL
) WITHOUT ROWID;

CREATE TABLE criterion (
    rubric TEXT NOT NULL REFERENCES rubric,
    id TEXT NOT NULL,
    position INTEGER NOT NULL,
    points INTEGER NOT NULL,
    PRIMARY KEY (rubric, id)
) WITHOUT ROWID;

CREATE TABLE template (
    sha256 TEXT PRIMARY KEY,
    text TEXT NOT NULL
) WITHOUT ROWID;

CREATE TABLE student (
    id INTEGER PRIMARY KEY,
    key TEXT NOT NULL UNIQUE,
    name TEXT NOT NULL,
    email TEXT NOT NULL,
    login TEXT NOT NULL,
    sis TEXT NOT NULL,
    canvas TEXT NOT NULL,
    moodle TEXT NOT NULL,
    expected INTEGER,              -- 1 on the roster, 0 not on it, NULL while there is none
    due TEXT NOT NULL,             -- a time of their own, from the roster, as are the next two
    extension REAL NOT NULL,       -- days
    days_late REAL                 -- NULL where the roster does not say
);

CREATE TABLE run (
    id INTEGER PRIMARY KEY,
    started TEXT NOT NULL,
    finished TEXT,                 -- NULL of a run that was cut off
    source TEXT NOT NULL,
    layout TEXT NOT NULL,
    rubric TEXT NOT NULL REFERENCES rubric,
    version TEXT NOT NULL,
    last_mark INTEGER NOT NULL,    -- the newest mark by hand when it began
    due TEXT NOT NULL              -- as the command was told, ISO 8601
);

CREATE TABLE result (
    id INTEGER PRIMARY KEY,
    student INTEGER NOT NULL REFERENCES student,
    rubric TEXT NOT NULL REFERENCES rubric,
    version TEXT NOT NULL,
    digest TEXT NOT NULL,
    verdict TEXT NOT NULL CHECK (verdict IN ('graded', 'unreadable', 'errored')),
    reason TEXT NOT NULL,
    score INTEGER NOT NULL,
    out_of INTEGER NOT NULL,
    pending INTEGER NOT NULL,
    signs TEXT NOT NULL,           -- a letter for each criterion: p f s ? !, - where it was not graded
    misses TEXT NOT NULL,          -- JSON: each failed criterion's position with what was measured, in a few words
    template TEXT REFERENCES template,  -- what the record is kept beside
    record BLOB NOT NULL           -- the report as compressed JSON
);
CREATE INDEX result_of_student ON result (student);

-- What a run has seen of a student, if that is not what the run before has seen.
CREATE TABLE seen (
    student INTEGER NOT NULL REFERENCES student,
    run INTEGER NOT NULL REFERENCES run,
    result INTEGER NOT NULL REFERENCES result,
    place TEXT NOT NULL,           -- JSON: paths, names, attempt, paths of earlier attempts
    fingerprint TEXT NOT NULL,
    is_late INTEGER NOT NULL,
    submitted TEXT NOT NULL,
    is_gone INTEGER NOT NULL,      -- 1 where the run before had found it, and this one did not
    PRIMARY KEY (student, run)
) WITHOUT ROWID;

CREATE TABLE mark (
    id INTEGER PRIMARY KEY,
    student INTEGER NOT NULL REFERENCES student,
    criterion TEXT NOT NULL,
    points INTEGER,                -- NULL takes the mark back: what the check says counts again
    comment TEXT NOT NULL,
    author TEXT NOT NULL,
    at TEXT NOT NULL,
    result INTEGER NOT NULL REFERENCES result
);
CREATE INDEX mark_of_student ON mark (student, criterion);

CREATE TRIGGER result_stays BEFORE DELETE ON result
BEGIN SELECT raise(ABORT, 'a result is never deleted'); END;
CREATE TRIGGER result_unchanged BEFORE UPDATE ON result
BEGIN SELECT raise(ABORT, 'a result is never changed: add another'); END;
-- INSERT OR REPLACE deletes what it replaces without asking the trigger above.
CREATE TRIGGER result_not_replaced BEFORE INSERT ON result WHEN EXISTS (SELECT 1 FROM result WHERE id = new.id)
BEGIN SELECT raise(ABORT, 'a result is never changed: add another'); END;
"""
    + _PROTECTION
    + _VIEWS.format_map(_FIRST_NAMES | _OF_EARLIER_VERSIONS)
)

_ROSTER_AND_ASSIGNMENT = """
ALTER TABLE student ADD COLUMN entry TEXT NOT NULL DEFAULT '';     -- the row of the roster as JSON, empty for one who is not on it
ALTER TABLE run ADD COLUMN assignment TEXT NOT NULL DEFAULT '';    -- what the class folder calls it, empty where it does not
"""

# `author` is for the audit: the name from `--by`, else the user account. Reports show `signed`, which holds only the name from
# `--by`. Marks from before this step have no `signed`, because their `author` may be an account.
_ANSWERS_AND_NAMES = """
ALTER TABLE mark ADD COLUMN signed TEXT NOT NULL DEFAULT '';

CREATE TABLE model_answer (
    rubric TEXT NOT NULL REFERENCES rubric,
    criterion TEXT NOT NULL,
    text TEXT NOT NULL,
    PRIMARY KEY (rubric, criterion)
) WITHOUT ROWID;
"""

# Version 4 names tables, columns and views by standard terms. SQLite rewrites the triggers that refer to what it renames; the
# views are made anew because the names of their columns change as well.
_STANDARD_NAMES = (
    """
DROP VIEW grade;
DROP VIEW ruled;
DROP VIEW ruling;

ALTER TABLE seen RENAME TO submission;                            -- of one student as one run has found it
ALTER TABLE submission RENAME COLUMN place TO files;
ALTER TABLE result RENAME COLUMN signs TO statuses;
ALTER TABLE result RENAME COLUMN misses TO failures;
ALTER TABLE run RENAME COLUMN due TO deadline;
ALTER TABLE student RENAME COLUMN due TO deadline;
ALTER TABLE student RENAME COLUMN expected TO is_on_roster;
ALTER TABLE student RENAME COLUMN entry TO roster_entry;
ALTER TABLE mark RENAME COLUMN signed TO grader_name;

DROP TRIGGER mark_stays;
DROP TRIGGER mark_unchanged;
DROP TRIGGER mark_not_replaced;
"""
    + _PROTECTION
    + _VIEWS.format_map({name: name for name in _FIRST_NAMES} | _OF_EARLIER_VERSIONS)
)

# Version 5 knows carried criteria (the letter c in `statuses`), why a submission is undecided, and which robots are identical.
_CARRIED_AND_IDENTICAL = """
DROP VIEW grade;
DROP VIEW override;
DROP VIEW manual_mark;

ALTER TABLE result ADD COLUMN undecided TEXT NOT NULL DEFAULT '';  -- why most of its undecided automatic points need manual grading
ALTER TABLE result ADD COLUMN urdf TEXT NOT NULL DEFAULT '';       -- the hash of the URDF
ALTER TABLE result ADD COLUMN robot TEXT NOT NULL DEFAULT '';      -- the hash of its normal form, empty where there is no robot

CREATE TABLE handed_out (                                          -- hashes of URDFs and robots that the course handed out
    sha256 TEXT PRIMARY KEY
) WITHOUT ROWID;
""" + _VIEWS.format_map(
    {name: name for name in _FIRST_NAMES}
    | {"has_points": "IN ('p', 'c')", "columns": "\n    result.undecided, result.urdf, result.robot,"}
)

# Version 6 keeps the proven hints of a result: a result has one rubric, version and digest, so they are never outdated.
_HINTS = """
CREATE TABLE hint (
    result INTEGER PRIMARY KEY REFERENCES result,
    hints TEXT NOT NULL            -- JSON, see grading/hints/record.py; an empty list if none was found
);
"""

EARLIER_STEPS = (_FIRST, _ROSTER_AND_ASSIGNMENT, _ANSWERS_AND_NAMES, _STANDARD_NAMES, _CARRIED_AND_IDENTICAL, _HINTS)
