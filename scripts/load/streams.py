"""Row 5: how soon a long answer begins."""

import demands
from client import Connection, accepted
from process import service
from report import Row

ROWS = 1_000_000


def first_byte(rounds, medium):
    """Milliseconds to the first byte of an answer's body, beside those to its last."""
    answers = []
    with service() as server:
        for _ in range(rounds):
            with Connection(server.address) as connection:
                answers.append(accepted(connection.exchange(demands.diagram(ROWS, medium))))
    first = [answer.first_byte * 1e3 for answer in answers]
    last = [answer.last_byte * 1e3 for answer in answers]
    note = f"{answers[0].length / 1e6:.0f} MB"
    return [Row(f"first byte of {ROWS:,} rows, {medium}", "ms", "last byte", first, last, at_most=0.1, note=note)]
