"""S3 as moto plays it, with a bucket `blobs`: HOST.

It prints its port; PUT /refuse/yes makes it refuse, PUT /refuse/no ends that. It runs in an environment of its own,
because moto wants older packages than the program.
"""

import sys

from moto.server import DomainDispatcherApplication, create_backend_app
from werkzeug.serving import make_server
from werkzeug.test import Client


class Gate:
    """A WSGI application that answers 503 while it is told to."""

    def __init__(self, app):
        self.app, self.refuses = app, False

    def __call__(self, environ, start_response):
        _, first, *rest = environ["PATH_INFO"].split("/")
        if first == "refuse":
            self.refuses = rest == ["yes"]
            start_response("204 No Content", [])
            return [b""]
        if self.refuses:
            start_response("503 Slow Down", [("Content-Length", "0")])
            return [b""]
        return self.app(environ, start_response)


if __name__ == "__main__":
    app = DomainDispatcherApplication(create_backend_app)
    assert Client(app).put("/blobs", headers={"Host": "s3.amazonaws.com"}).status_code == 200
    running = make_server(sys.argv[1], 0, Gate(app), threaded=True)
    print(running.port, flush=True)
    running.serve_forever()
