"""Rows 1, 2 and 7: small requests beside a bare server."""

import demands
import instructions
import wrk
from client import Connection, accepted
from process import hello, service
from report import Row

SECONDS = 4
HELLO = demands.hello()


def counted(_):
    """Instructions of one direction."""
    value, floor = instructions.service(demands.one()), instructions.hello(HELLO)
    return [Row("one direction", "instructions", "axum hello", [value], [floor], at_most=5.0)]


def timed(rounds):
    """Processor time of one direction, 64 keep-alive connections."""
    with service() as server, hello() as bare:
        values, floors = beside(server, demands.one(), bare, rounds)
    return [Row("one direction, 64 connections", "µs CPU", "axum hello", values, floors, at_most=2.5)]


def repeated(rounds, medium):
    """Processor time of a diagram that the client has already."""
    usual = {**demands.USUAL, "accept": medium}
    with service() as server, hello() as bare:
        with Connection(server.address) as connection:
            tag = accepted(connection.exchange(demands.diagram(161, **usual), keep=True)).headers["etag"]
            again = demands.diagram(161, **usual, if_none_match=tag)
            if (status := connection.exchange(again).status) != 304:
                raise RuntimeError(f"a repeated diagram was answered {status}, not 304")
        values, floors = beside(server, again, bare, rounds)
    what = f"a repeated GET diagram with If-None-Match, {medium}"
    return [Row(what, "µs CPU", "axum hello", values, floors, at_most=2.0)]


def beside(server, message, bare, rounds):
    """Microseconds of both, in turn. The first, shorter round warms them up."""
    wrk.run(server, message, 1)
    wrk.run(bare, HELLO, 1)
    values, floors = [], []
    for _ in range(rounds):
        values.append(wrk.run(server, message, SECONDS)["cpu"] * 1e6)
        floors.append(wrk.run(bare, HELLO, SECONDS)["cpu"] * 1e6)
    return values, floors
