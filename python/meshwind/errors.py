"""What is raised when input, files or numbers are at fault; docs/errors.md has the codes."""


class Error(Exception):
    """An error with a stable code, the place it concerns, and one line of words that ends in the mend.

    code   e.g. "mesh.not_orientable"
    place  file, file:line, or file plus JSON pointer; may be empty
    words  the line without the place
    """

    def __init__(self, code, place, words):
        super().__init__(f"{place}: {words}" if place else words)
        self.code = code
        self.place = place
        self.words = words

    def __reduce__(self):
        return type(self), (self.code, self.place, self.words)

    def __str__(self):
        return self.args[0]


class InputError(Error, ValueError):
    """The data or the request cannot be used."""


class IoError(Error, OSError):
    """A file cannot be read or written."""


class NumericalError(Error, ArithmeticError):
    """An algorithm could not reach its stated accuracy on valid input."""
