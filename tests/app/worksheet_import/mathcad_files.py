"""Builds sheets of Mathcad for the tests: small .mcdx packages and .xmcd documents of our own making."""

import io
import zipfile
from dataclasses import dataclass
from xml.sax.saxutils import escape

SHEET = "http://schemas.mathsoft.com/worksheet50"
MATH = "http://schemas.mathsoft.com/math50"
UNITS = "http://schemas.mathsoft.com/units10"
LEGACY, LEGACY_MATH = "http://schemas.mathsoft.com/worksheet30", "http://schemas.mathsoft.com/math30"


def name(text, label="VARIABLE"):
    """A name; what stands behind an underscore is its subscript."""
    head, _, below = text.partition("_")
    if not below:
        return f'<ml:id labels="{label}" xml:space="preserve">{escape(head)}</ml:id>'
    span = f'<Span xmlns:pw="clr">{escape(head)}<pw:Subscript>{escape(below)}</pw:Subscript></Span>'
    return f'<ml:id labels="{label}" xml:space="preserve">{span}</ml:id>'


def unit(text):
    return name(text, "UNIT")


def constant(text):
    return name(text, "CONSTANT")


def real(value):
    return f"<ml:real>{value}</ml:real>"


def text(value):
    return f"<ml:str>{escape(value)}</ml:str>"


def tag(kind, *parts, **attributes):
    said = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f"<ml:{kind}{said}>{''.join(parts)}</ml:{kind}>"


def apply(operator, *parts):
    """An operator by its element, or a function by its name."""
    return f"<ml:apply><ml:{operator}/>{''.join(parts)}</ml:apply>"


def call(function, *parts):
    given = parts[0] if len(parts) == 1 else tag("sequence", *parts)
    return f"<ml:apply>{name(function, 'FUNCTION')}{given}</ml:apply>"


def scale(value, of):
    return apply("scale", real(value), unit(of))


def vector(*parts):
    return tag("matrix", *parts, rows=len(parts), cols=1)


def define(target, value):
    return tag("define", target if target.startswith("<") else name(target), value)


def define_function(function, parameters, body):
    bound = tag("boundVars", *(name(parameter) for parameter in parameters))
    return tag("define", tag("function", name(function), bound), body)


def shown(value, asked="<ml:placeholder/>"):
    return tag("eval", value, tag("unitOverride", asked))


def united(value, **powers):
    """A stored result with its unit, by the names of Mathcad: united(8, meter=2)."""
    references = "".join(
        f'<u:unitReference unit="{key}" power-numerator="{power}" power-denominator="1"/>'
        for key, power in powers.items()
    )
    return f"<unitedValue>{value}<u:unitMonomial>{references}</u:unitMonomial></unitedValue>"


@dataclass(frozen=True)
class Region:
    """A region of a sheet: what is in it, its stored result, its tag."""

    body: str = ""
    result: str = ""
    tag: str = ""
    words: str = ""
    raw: str = ""
    role: str = ""


def math(body, result="", tag=""):
    return Region(body, result if not result or result.startswith("<") else real(result), tag)


def words(said):
    return Region(words=said)


def raw(element):
    """A region that holds any element of a sheet, such as a plot."""
    return Region(raw=element)


def _text_package(said):
    body = f'<Section xmlns="http://x"><Paragraph><Run>{escape(said)}</Run></Paragraph></Section>'
    return packed({"Xaml/Document.xaml": body.encode()})


def packed(parts, method=zipfile.ZIP_DEFLATED):
    """A ZIP of parts by name."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", method) as archive:
        for key, part in parts.items():
            archive.writestr(key, part)
    return content.getvalue()


def parts_of(*regions, origin=0):
    """The parts of a .mcdx with these regions."""
    said, results, relations, tags = [], [], [], []
    parts = {}
    for number, region in enumerate(regions):
        place = f'region-id="{number}" top="{20 * number}" left="10"'
        place += f' solve-block-category="{region.role}"' if region.role else ""
        if region.words:
            key = f"mathcad/xaml/FlowDocument{number}.XamlPackage"
            parts[key] = _text_package(region.words)
            relations.append(f'<Relationship Target="/{key}" Id="R{number}"/>')
            body = f'<text item-idref="R{number}"/>'
        elif region.raw:
            body = region.raw
        else:
            body = f'<math resultRef="{number}">{region.body}<resultFormat/></math>'
        said.append(f"<region {place}>{body}</region>")
        inner = f"<ml:result>{region.result}</ml:result>" if region.result else ""
        results.append(f'<resultData result-id="{number}">{inner}</resultData>')
        if region.tag:
            tags.append(f'<region region-id="{number}" ioTagType="{region.tag}"/>')
    settings = f'<builtInVariables array-origin="{origin}"/>'
    spaces = f'xmlns="{SHEET}" xmlns:ml="{MATH}" xmlns:u="{UNITS}"'
    return {
        "mathcad/worksheet.xml": f"<worksheet {spaces}><regions>{''.join(said)}</regions></worksheet>",
        "mathcad/result.xml": f"<resultsList {spaces}>{''.join(results)}</resultsList>",
        "mathcad/_rels/worksheet.xml.rels": f"<Relationships>{''.join(relations)}</Relationships>",
        "mathcad/integration.xml": f"<regions>{''.join(tags)}</regions>",
        "mathcad/settings/calculation.xml": f"<calculation>{settings}</calculation>",
        **parts,
    }


def prime(*regions, origin=0):
    """A .mcdx with these regions."""
    return packed(parts_of(*regions, origin=origin))


def legacy(*bodies, origin=0):
    """A .xmcd with regions of these bodies."""
    regions = "".join(
        f'<region region-id="{number}" left="6" align-y="{20 * number}" tag="">{body}</region>'
        for number, body in enumerate(bodies)
    )
    settings = f'<settings><calculation><builtInVariables array-origin="{origin}"/></calculation></settings>'
    head = f'<worksheet xmlns="{LEGACY}" xmlns:ml="{LEGACY_MATH}" xmlns:u="{UNITS}">{settings}'
    return f'<?xml version="1.0"?>{head}<regions>{regions}</regions></worksheet>'.encode()


def legacy_math(body):
    return f"<math>{body}</math>"
