"""The views of a gradebook: what of its rows counts now. Each grade is computed in SQL, for a whole class at once."""

VIEWS = """
-- The entries that count: the newest of each student and criterion, unless it withdraws a mark.
-- A second opinion never counts.
CREATE VIEW current_mark AS
SELECT * FROM mark WHERE kind IN ('points', 'comment', 'excused') AND id = (
    SELECT max(id) FROM mark AS newer
    WHERE newer.student = mark.student AND newer.criterion = mark.criterion AND newer.kind <> 'second'
);

-- The newest second opinion of each grader on a student's criterion, also one that withdraws it.
-- By time, not by id: a merge appends older ones.
CREATE VIEW second_mark AS
SELECT mark.*, result.digest FROM mark JOIN result ON result.id = mark.result WHERE kind = 'second' AND mark.id = (
    SELECT id FROM mark AS newer WHERE newer.student = mark.student AND newer.criterion = mark.criterion
        AND newer.kind = 'second' AND newer.grader_name = mark.grader_name ORDER BY at DESC, id DESC LIMIT 1
);

-- The manual marks of criteria.
CREATE VIEW manual_mark AS SELECT * FROM current_mark WHERE kind = 'points' AND criterion <> 'total';

CREATE VIEW newest_submission AS
SELECT * FROM submission
WHERE run = (SELECT max(run) FROM submission AS newer WHERE newer.student = submission.student);

-- What the manual marks change in each student's newest result: sums over a class, without reading each rubric.
-- criterion_points (gradebook/result.py) has the same rules for one student; tests/classroom/gradebook compares both.
-- CROSS JOIN makes SQLite start from the few marks.
-- `older` names the criteria whose mark was given for another submission, `revalued` those that had another maximum
-- then, and `over` those whose mark exceeds the maximum.
CREATE VIEW override AS
SELECT student,
    count(*) AS marks,
    sum(points - iif(status IS NULL, maximum, coalesce(automatic, 0))) AS score,
    sum(iif(status = 'ungraded' AND NOT is_bonus, maximum, 0)) AS out_of,
    sum(iif(status = 'pending', maximum, 0)) AS pending,
    sum(status IS 'errored') AS faults,
    group_concat(iif(is_older, id, NULL), ' ') AS older,
    group_concat(iif(is_revalued AND NOT is_older, id, NULL), ' ') AS revalued,
    group_concat(iif(points > maximum, id, NULL), ' ') AS over
FROM (
    SELECT manual_mark.student, manual_mark.points, criterion.id, criterion.points AS maximum, criterion.is_bonus,
        outcome.status, outcome.points AS automatic,
        marked.id <> result.id AND (marked.digest = '' OR marked.digest <> result.digest) AS is_older,
        marked.id <> result.id AND before.points IS NOT criterion.points AS is_revalued
    FROM manual_mark
    CROSS JOIN result AS marked ON marked.id = manual_mark.result
    LEFT JOIN criterion AS before ON before.rubric = marked.rubric AND before.id = manual_mark.criterion
    CROSS JOIN newest_submission AS newest ON newest.student = manual_mark.student
    CROSS JOIN result ON result.id = newest.result
    CROSS JOIN criterion ON criterion.rubric = result.rubric AND criterion.id = manual_mark.criterion
        AND NOT criterion.is_adjusted
    LEFT JOIN outcome ON outcome.result = result.id AND outcome.position = criterion.position
)
GROUP BY student;

-- The current grade of every student: the automatic points with the manual marks.
-- A final mark (`final`) replaces the total.
CREATE VIEW grade AS
SELECT student.*, newest.run, newest.result, coalesce(result.rubric, '') AS rubric, result.version,
    coalesce(result.digest, '') AS digest,
    coalesce(result.verdict, 'missing') AS verdict, coalesce(result.reason, '') AS reason,
    coalesce(result.parts, '') AS parts,
    result.score + coalesce(override.score, 0) AS score,
    result.out_of + coalesce(override.out_of, 0) AS out_of,
    result.pending - coalesce(override.pending, 0) AS pending,
    (SELECT count(*) FROM outcome WHERE outcome.result = newest.result AND status = 'errored')
        - coalesce(override.faults, 0) AS faults,
    coalesce(override.marks, 0) AS marks, coalesce(override.older, '') AS older_marks,
    coalesce(override.revalued, '') AS revalued_marks, coalesce(override.over, '') AS over_marks,
    coalesce((SELECT group_concat(criterion, ' ') FROM manual_mark AS mark WHERE mark.student = student.id
        AND NOT EXISTS (SELECT 1 FROM criterion WHERE rubric = result.rubric AND id = mark.criterion)), '')
        AS removed_marks,
    whole.points AS final, coalesce(whole.kind = 'excused', 0) AS is_excused,
    coalesce(whole.kind IN ('points', 'excused') AND whole.result IS NOT newest.result
        AND (SELECT nullif(digest, '') FROM result AS marked WHERE marked.id = whole.result) IS NOT result.digest, 0)
        AS final_is_older,
    coalesce(newest.is_gone, 0) AS is_gone, result.urdf, result.robot, result.forms,
    coalesce(newest.files, '[[], [], 0, []]') AS files, coalesce(newest.fingerprint, '') AS fingerprint,
    coalesce(newest.is_late, 0) AS is_late, coalesce(newest.submitted, '') AS submitted,
    coalesce(run.source, '') AS source, coalesce(run.max_size, 0) AS max_size
FROM student
LEFT JOIN newest_submission AS newest ON newest.student = student.id
LEFT JOIN result ON result.id = newest.result
LEFT JOIN run ON run.id = newest.run
LEFT JOIN override ON override.student = student.id
LEFT JOIN current_mark AS whole ON whole.student = student.id AND whole.criterion = 'total';
"""
