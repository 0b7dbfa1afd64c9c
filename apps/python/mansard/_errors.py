"""What goes wrong, as exceptions."""


class Error(Exception):
    """Something is wrong with the input, an option or an output.

    Attributes:
        diagnostics: all that is wrong, the most important first; each has ``code``, ``message`` and ``subject``.
        code: the code of the first one, for example ``"ingest-mesh-empty"``. Codes are never renamed.
        message: what is wrong with it and what to do.
        subject: a file, a feature id or an option; empty where nothing can be named.
    """

    def __init__(self, diagnostics):
        self.diagnostics = list(diagnostics)
        first = self.diagnostics[0]
        self.code = first.code
        self.message = first.message
        self.subject = first.subject
        super().__init__("\n".join(str(diagnostic) for diagnostic in self.diagnostics))

    @property
    def remedy(self):
        """What to do about errors with this code."""
        from . import _core

        return _core.code_table().get(self.code, {}).get("remedy", "")
