"""The tables of a gradebook. Points are whole numbers of ten-thousandths."""

APPLICATION_ID = 0x47524452  # "GRDR": the type of the file in its SQLite header
VERSION = 2
JSON_COLUMNS = ("files", "forms", "hints", "measured", "roster_entry")  # or empty

TABLES = """
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
    is_bonus INTEGER NOT NULL,
    is_adjusted INTEGER NOT NULL,  -- manual marks do not count
    is_manual INTEGER NOT NULL,    -- only a person decides it
    PRIMARY KEY (rubric, id)
) WITHOUT ROWID;

CREATE TABLE model_answer (
    rubric TEXT NOT NULL REFERENCES rubric,
    criterion TEXT NOT NULL,
    text TEXT NOT NULL,
    PRIMARY KEY (rubric, criterion)
) WITHOUT ROWID;

CREATE TABLE dictionary (          -- the record that most others of a rubric resemble: zlib's preset dictionary
    sha256 TEXT PRIMARY KEY,
    text BLOB NOT NULL
) WITHOUT ROWID;

CREATE TABLE handed_out (          -- hashes of URDFs and robots that the course handed out
    sha256 TEXT PRIMARY KEY
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
    is_on_roster INTEGER,          -- 1 on the roster, 0 not on it, NULL without a roster
    deadline TEXT NOT NULL,        -- the student's own, from the roster, as are the next two
    extension REAL NOT NULL,       -- days
    days_late REAL,                -- NULL if the roster does not say
    roster_entry TEXT NOT NULL,    -- the row of the roster as JSON, empty for a student who is not on it
    section TEXT NOT NULL,
    marker TEXT NOT NULL           -- the person who grades the student manually
);

CREATE TABLE run (
    id INTEGER PRIMARY KEY,
    started TEXT NOT NULL,
    finished TEXT,                 -- NULL if the run was interrupted
    source TEXT NOT NULL,
    layout TEXT NOT NULL,
    rubric TEXT NOT NULL REFERENCES rubric,
    version TEXT NOT NULL,         -- of the grader
    last_mark INTEGER NOT NULL,    -- the newest manual mark when the run began
    deadline TEXT NOT NULL,        -- as the command was given it, ISO 8601
    max_size INTEGER NOT NULL,     -- bytes of a URDF
    assignment TEXT NOT NULL       -- its name in the class folder, empty if it has none
);

CREATE TABLE result (
    id INTEGER PRIMARY KEY,
    student INTEGER NOT NULL REFERENCES student,
    rubric TEXT NOT NULL REFERENCES rubric,
    version TEXT NOT NULL,         -- of the grader
    digest TEXT NOT NULL,
    verdict TEXT NOT NULL CHECK (verdict IN ('graded', 'unreadable', 'errored')),
    reason TEXT NOT NULL,
    parts TEXT NOT NULL,           -- ids between spaces
    score INTEGER NOT NULL,
    out_of INTEGER NOT NULL,
    pending INTEGER NOT NULL,
    dictionary TEXT REFERENCES dictionary,
    record BLOB NOT NULL,          -- the report as compressed JSON, see grading/record.py
    urdf TEXT NOT NULL,            -- the hash of the URDF
    robot TEXT NOT NULL,           -- the hash of its normal form, empty if there is no robot
    forms TEXT NOT NULL            -- other forms of the work, as JSON, see gradebook/identical.py
);
CREATE INDEX result_of_student ON result (student);

-- A criterion without an outcome passed: most do, and a class would have three times the rows.
CREATE TABLE outcome (
    result INTEGER NOT NULL REFERENCES result,
    position INTEGER NOT NULL,     -- of the criterion in the rubric
    -- It did not pass, but loses nothing: `carried` if only an earlier mistake is the cause, `adjusted` by the rubric.
    status TEXT NOT NULL CHECK
        (status IN ('failed', 'skipped', 'carried', 'adjusted', 'pending', 'errored', 'ungraded')),
    points INTEGER,                -- NULL if it is undecided
    cause TEXT NOT NULL,           -- what equal mistakes, or equal reasons for manual grading, have in common
    measured TEXT,                 -- JSON, see gradebook/graded_students.py; NULL unless numbers were compared
    PRIMARY KEY (result, position)
) WITHOUT ROWID;

-- The proven hints of a result: it has one rubric, version and digest, so they are never outdated.
CREATE TABLE hint (
    result INTEGER PRIMARY KEY REFERENCES result,
    hints TEXT NOT NULL            -- JSON, see grading/hints/record.py; an empty list if none was found
);

-- What a run has found of a student, if that differs from what the run before has found.
CREATE TABLE submission (
    student INTEGER NOT NULL REFERENCES student,
    run INTEGER NOT NULL REFERENCES run,
    result INTEGER NOT NULL REFERENCES result,
    files TEXT NOT NULL,           -- JSON: paths, names, attempt, paths of earlier attempts
    fingerprint TEXT NOT NULL,
    is_late INTEGER NOT NULL,
    submitted TEXT NOT NULL,
    is_gone INTEGER NOT NULL,      -- 1 if the run before had found it, and this one did not
    PRIMARY KEY (student, run)
) WITHOUT ROWID;

CREATE TABLE mark (
    id INTEGER PRIMARY KEY,
    student INTEGER NOT NULL REFERENCES student,
    criterion TEXT NOT NULL,       -- `total`: a final mark, an excuse, a comment; `new deadline`: the time as comment
    -- A second opinion without points is withdrawn.
    points INTEGER CHECK (iif(points IS NULL, kind <> 'points', kind IN ('points', 'second'))),
    comment TEXT NOT NULL,
    author TEXT NOT NULL,          -- for the audit: the name from --by, else the user account
    at TEXT NOT NULL,
    result INTEGER REFERENCES result,  -- the student's newest result at that time, NULL without a submission
    grader_name TEXT NOT NULL,     -- the name in reports, from --by
    kind TEXT NOT NULL CHECK (kind IN ('points', 'withdrawn', 'comment', 'excused', 'second'))
);
CREATE INDEX mark_of_student ON mark (student, criterion);

CREATE TRIGGER result_stays BEFORE DELETE ON result
BEGIN SELECT raise(ABORT, 'a result is never deleted'); END;
CREATE TRIGGER result_unchanged BEFORE UPDATE ON result
BEGIN SELECT raise(ABORT, 'a result is never changed: add another'); END;
-- INSERT OR REPLACE deletes what it replaces without asking the trigger above.
CREATE TRIGGER result_not_replaced BEFORE INSERT ON result WHEN EXISTS (SELECT 1 FROM result WHERE id = new.id)
BEGIN SELECT raise(ABORT, 'a result is never changed: add another'); END;

CREATE TRIGGER outcome_stays BEFORE DELETE ON outcome
BEGIN SELECT raise(ABORT, 'a result is never deleted'); END;
CREATE TRIGGER outcome_unchanged BEFORE UPDATE ON outcome
BEGIN SELECT raise(ABORT, 'a result is never changed: add another'); END;

CREATE TRIGGER mark_stays BEFORE DELETE ON mark
BEGIN SELECT raise(ABORT, 'a manual mark is never deleted'); END;
CREATE TRIGGER mark_unchanged BEFORE UPDATE ON mark
BEGIN SELECT raise(ABORT, 'a manual mark is never changed: add another'); END;
CREATE TRIGGER mark_not_replaced BEFORE INSERT ON mark WHEN EXISTS (SELECT 1 FROM mark WHERE id = new.id)
BEGIN SELECT raise(ABORT, 'a manual mark is never changed: add another'); END;
"""
