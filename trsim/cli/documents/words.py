"""Documents about the words of scenario files."""

from typing import Any

from typing_extensions import TypedDict  # pydantic wants this one before Python 3.12

from trsim.cli.documents.common import Document


class Key(TypedDict):
    """A key of a mapping in a scenario file.

    place     ELEMENT.KEY or SECTION.KEY, and on into mappings
    meaning   in words
    type      what it may be, in words; a number is also a quantity or an expression
    unit      SI; "-" of plain numbers, null of what is no number
    required  whether it must be given
    default   what it is if it is not; null where nothing is
    """

    place: str
    meaning: str
    type: str
    unit: str | None
    required: bool
    default: str | float | bool | list[Any] | None


class Channel(TypedDict):
    """A recorded quantity.

    name     NAME stands for that of the entry
    unit     SI; two where it depends on the joint
    size     numbers in it
    meaning  in words
    """

    name: str
    unit: str
    size: int
    meaning: str


class Page(TypedDict):
    """What there is to say of a word.

    law      equations and conventions
    about    what it is
    keys     what one writes
    example  a scenario that runs
    """

    word: str
    law: str
    about: str
    keys: list[Key]
    example: str


class ElementPage(Page):
    """An element.

    word         after `type:`
    section      where it stands
    coordinates  of a joint, or of a sensor
    channels     what is recorded
    """

    section: str
    coordinates: list[str]
    channels: list[Channel]


class SectionPage(Page):
    """A section of a scenario file.

    word      its name
    law       equations and conventions, or ""
    type      what it may be, in words
    unit      SI, or null
    elements  that may stand in it
    keys      of it, or of its entries
    example   a scenario that runs, or ""
    """

    type: str
    unit: str | None
    elements: list[str]


class FunctionPage(TypedDict):
    """A function of expressions, or a key of tables.

    word     its name
    written  how it is written
    meaning  in words
    """

    word: str
    written: str
    meaning: str


class ChannelPage(Channel):
    """A recorded quantity of an element.

    element  after `type:`
    """

    element: str


class UnitPage(TypedDict):
    """A unit.

    word    as written
    factor  what one of it is in `unit`
    unit    SI
    kind    what is measured in it, in words, or ""
    """

    word: str
    factor: float
    unit: str
    kind: str


class TopicPage(TypedDict):
    """What there is for a word that is no key.

    word  as asked for
    text  in words; what stands in backticks can be asked for
    """

    word: str
    text: str


class Explain(Document):
    """trsim explain.

    word       as given, or null: then everything follows
    elements   of that name
    sections   of that name
    keys       of that name, and of the mappings they hold
    functions  of expressions, and keys of tables, of that name
    values     keys that may be it
    channels   of that name
    units      of that name
    topics     of that name
    """

    word: str | None
    elements: list[ElementPage]
    sections: list[SectionPage]
    keys: list[Key]
    functions: list[FunctionPage]
    values: list[Key]
    channels: list[ChannelPage]
    units: list[UnitPage]
    topics: list[TopicPage]


class TemplateRow(TypedDict):
    """A scenario to begin with.

    name   after --template
    title  of the scenario
    about  what it is, and what to expect
    files  that are written, the one to begin with first
    """

    name: str
    title: str
    about: str
    files: list[str]


class Init(Document):
    """trsim init.

    template   which one was written, or null: then they are listed
    title      of its scenario
    about      what it is, and what to expect
    files      as written, the one to begin with first
    commands   to try, in the folder of the files
    templates  where they are listed
    """

    template: str | None
    title: str | None
    about: str | None
    files: list[str]
    commands: list[str]
    templates: list[TemplateRow]


class Schema(Document):
    """trsim schema.

    what      whose schema it is
    schema    itself; null where it went into a file
    file      where it went, or null
    modeline  first line of a scenario file that has an editor check it, or null
    """

    what: str
    schema: dict[str, Any] | None
    file: str | None
    modeline: str | None
