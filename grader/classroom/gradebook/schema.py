"""The tables of a gradebook, as one SQL script for each version. Points are whole numbers of ten-thousandths."""

from grader.classroom.gradebook.earlier_schema import EARLIER_STEPS

APPLICATION_ID = 0x47524452  # "GRDR": the type of the file in its SQLite header

# Version 7: final marks and excuses, also without a submission; comments without points; second opinions; sections and markers of
# students; extra credit, and adjusted criteria, whose manual marks do not count.
_FINAL_MARKS_AND_SECTIONS = """
DROP VIEW grade;
DROP VIEW override;
DROP VIEW manual_mark;

ALTER TABLE student ADD COLUMN section TEXT NOT NULL DEFAULT '';
ALTER TABLE student ADD COLUMN marker TEXT NOT NULL DEFAULT '';    -- the person who grades the student manually
ALTER TABLE criterion ADD COLUMN is_bonus INTEGER NOT NULL DEFAULT 0;
ALTER TABLE criterion ADD COLUMN is_adjusted INTEGER NOT NULL DEFAULT 0;

DROP TRIGGER mark_stays;
DROP TRIGGER mark_unchanged;
DROP TRIGGER mark_not_replaced;
DROP INDEX mark_of_student;
ALTER TABLE mark RENAME TO earlier_mark;
CREATE TABLE mark (
    id INTEGER PRIMARY KEY,
    student INTEGER NOT NULL REFERENCES student,
    criterion TEXT NOT NULL,       -- `total` for the whole submission: a final mark, an excuse, a comment
    points INTEGER CHECK (iif(points IS NULL, kind <> 'points', kind IN ('points', 'second'))),  -- NULL: second opinion withdrawn
    comment TEXT NOT NULL,
    author TEXT NOT NULL,          -- for the audit
    at TEXT NOT NULL,
    result INTEGER REFERENCES result,  -- the student's newest result at that time, NULL without a submission
    grader_name TEXT NOT NULL,     -- the name in reports, from --by
    kind TEXT NOT NULL CHECK (kind IN ('points', 'withdrawn', 'comment', 'excused', 'second'))
);
INSERT INTO mark SELECT id, student, criterion, points, comment, author, at, result, grader_name,
    iif(points IS NULL, 'withdrawn', 'points') FROM earlier_mark;
DROP TABLE earlier_mark;
CREATE INDEX mark_of_student ON mark (student, criterion);
CREATE TRIGGER mark_stays BEFORE DELETE ON mark
BEGIN SELECT raise(ABORT, 'a manual mark is never deleted'); END;
CREATE TRIGGER mark_unchanged BEFORE UPDATE ON mark
BEGIN SELECT raise(ABORT, 'a manual mark is never changed: add another'); END;
CREATE TRIGGER mark_not_replaced BEFORE INSERT ON mark WHEN EXISTS (SELECT 1 FROM mark WHERE id = new.id)
BEGIN SELECT raise(ABORT, 'a manual mark is never changed: add another'); END;

-- The entries that count: the newest of each student and criterion, unless it withdraws a mark. A second opinion never counts.
CREATE VIEW current_mark AS
SELECT * FROM mark WHERE kind IN ('points', 'comment', 'excused') AND id = (
    SELECT max(id) FROM mark AS newer
    WHERE newer.student = mark.student AND newer.criterion = mark.criterion AND newer.kind <> 'second'
);

-- The newest second opinion of each grader on a student's criterion, also one that withdraws it. A merge appends older ones.
CREATE VIEW second_mark AS
SELECT mark.*, result.digest FROM mark JOIN result ON result.id = mark.result WHERE kind = 'second' AND mark.id = (
    SELECT id FROM mark AS newer WHERE newer.student = mark.student AND newer.criterion = mark.criterion
        AND newer.kind = 'second' AND newer.grader_name = mark.grader_name ORDER BY at DESC, id DESC LIMIT 1
);

-- The manual marks of criteria.
CREATE VIEW manual_mark AS SELECT * FROM current_mark WHERE kind = 'points' AND criterion <> 'total';

-- What the manual marks change in each student's newest result. CROSS JOIN makes SQLite start from the few marks. `older` names
-- the criteria whose mark was given for another submission, `revalued` those that had another maximum then, and `over` those
-- whose mark exceeds the maximum.
CREATE VIEW override AS
SELECT student,
    count(*) AS marks,
    sum(points - iif(status IN ('p', 'c'), maximum, 0)) AS score,
    sum(iif(status = '-' AND NOT is_bonus, maximum, 0)) AS out_of,
    sum(iif(status = '?', maximum, 0)) AS pending,
    sum(status = '!') AS faults,
    group_concat(iif(is_older, id, NULL), ' ') AS older,
    group_concat(iif(is_revalued AND NOT is_older, id, NULL), ' ') AS revalued,
    group_concat(iif(points > maximum, id, NULL), ' ') AS over
FROM (
    SELECT manual_mark.student, manual_mark.points, criterion.id, criterion.points AS maximum, criterion.is_bonus,
        substr(result.statuses, criterion.position + 1, 1) AS status,
        marked.id <> result.id AND (marked.digest = '' OR marked.digest <> result.digest) AS is_older,
        marked.id <> result.id AND before.points IS NOT criterion.points AS is_revalued
    FROM manual_mark
    CROSS JOIN result AS marked ON marked.id = manual_mark.result
    LEFT JOIN criterion AS before ON before.rubric = marked.rubric AND before.id = manual_mark.criterion
    CROSS JOIN submission ON submission.student = manual_mark.student
        AND submission.run = (SELECT max(run) FROM submission AS newer WHERE newer.student = manual_mark.student)
    CROSS JOIN result ON result.id = submission.result
    CROSS JOIN criterion ON criterion.rubric = result.rubric AND criterion.id = manual_mark.criterion
        AND NOT criterion.is_adjusted
)
GROUP BY student;

-- The current grade of every student: the automatic points with the manual marks. A final mark (`final`) replaces the total.
CREATE VIEW grade AS
SELECT student.*, submission.run, submission.result, result.rubric, result.version, result.digest,
    coalesce(result.verdict, 'missing') AS verdict, coalesce(result.reason, '') AS reason,
    result.score + coalesce(override.score, 0) AS score,
    result.out_of + coalesce(override.out_of, 0) AS out_of,
    result.pending - coalesce(override.pending, 0) AS pending,
    length(statuses) - length(replace(statuses, '!', '')) - coalesce(override.faults, 0) AS faults,
    coalesce(override.marks, 0) AS marks, coalesce(override.older, '') AS older_marks,
    coalesce(override.revalued, '') AS revalued_marks, coalesce(override.over, '') AS over_marks,
    coalesce((SELECT group_concat(criterion, ' ') FROM manual_mark AS mark WHERE mark.student = student.id AND NOT EXISTS
        (SELECT 1 FROM criterion WHERE rubric = result.rubric AND id = mark.criterion)), '') AS removed_marks,
    whole.points AS final, coalesce(whole.kind = 'excused', 0) AS is_excused,
    whole.kind IN ('points', 'excused') AND whole.result IS NOT submission.result
        AND (SELECT nullif(digest, '') FROM result AS marked WHERE marked.id = whole.result) IS NOT result.digest AS final_is_older,
    coalesce(submission.is_gone, 0) AS is_gone,
    result.statuses, coalesce(result.failures, '[]') AS failures,
    result.undecided, result.urdf, result.robot,
    coalesce(submission.files, '[[], [], 0, []]') AS files, submission.fingerprint,
    coalesce(submission.is_late, 0) AS is_late, coalesce(submission.submitted, '') AS submitted,
    run.source
FROM student
LEFT JOIN submission ON submission.student = student.id
    AND submission.run = (SELECT max(run) FROM submission AS newer WHERE newer.student = student.id)
LEFT JOIN result ON result.id = submission.result
LEFT JOIN run ON run.id = submission.run
LEFT JOIN override ON override.student = student.id
LEFT JOIN current_mark AS whole ON whole.student = student.id AND whole.criterion = 'total';
"""

# The first step makes version 1; each later one brings a gradebook to the next version. A step that was released never changes.
STEPS = (*EARLIER_STEPS, _FINAL_MARKS_AND_SECTIONS)
