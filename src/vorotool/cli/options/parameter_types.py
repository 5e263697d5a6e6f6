"""The base of the types of options, which says what they convert to whether or not click's own class can."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    ParameterType = click.ParamType
else:

    class ParameterType(click.ParamType):
        """A type of options: ``ParameterType[float]`` converts to numbers.

        Only click from 8.4 on says it for its own class.
        """

        def __class_getitem__(cls, converted: Any) -> type[ParameterType]:
            """Give the class itself: what it converts to is for readers and type checkers."""
            return cls

        def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:
            """Give the name as it is written: ``WxH``, not ``WXH``."""
            return self.name
