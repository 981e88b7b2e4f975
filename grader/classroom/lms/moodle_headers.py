"""Headers of a Moodle grading worksheet, in lower case, as its language packs have them (assign.php, assignfeedback_comments.php).

In English, German, French, Spanish, Italian, Portuguese, Brazilian and Dutch, as far as they were looked up. The worksheet's
other columns are detected by their place and their values, so that a language that is not here mostly works as well.
"""

IDENTIFIER = frozenset({"identifier", "id", "identifiant", "identificador", "identificativo", "identificatie"})
MAXIMUM = frozenset(
    {
        "maximum grade",
        "bestwertung",
        "note maximale",
        "calificación máxima",
        "valutazione massima",
        "nota máxima",
        "maximaal cijfer",
    }
)
CHANGEABLE = frozenset(
    {
        "grade can be changed",
        "bewertung kann geändert werden",
        "la note peut être modifiée",
        "la calificación puede ser cambiada",
        "la calificación puede cambiarse",
        "la valutazione può essere cambiata",
        "a nota pode ser alterada.",
        "nota pode ser alterada",
    }
)
FEEDBACK = frozenset(
    {
        "feedback comments",
        "feedback als kommentar",
        "feedback par commentaires",
        "comentarios de retroalimentación",
        "commenti",
        "comentários de feedback",
        "feedback",
    }
)
MODIFIED = frozenset(
    {
        "last modified (grade)",
        "zuletzt geändert (bewertung)",
        "dernière modification (note)",
        "última modificación (calificación)",
        "ultima modifica (valutazione)",
        "última atualização (avaliação)",
        "última modificação (nota)",
        "laatst gewijzigd (beoordeling)",
    }
)
STATUS = frozenset({"status", "statut", "stato", "estado"})
NUMBERS = frozenset({"id number", "id-nummer", "username"})

NO = frozenset({"no", "nein", "non", "não", "nee"})
