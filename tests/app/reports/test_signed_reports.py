"""Reports contain the signatures; a printed report is verified line by line, and tampering is named."""

import io

import httpx
import pypdf
import pytest
from approving import Room, signed, signing
from click.testing import CliRunner
from serving import API, created, paper, patched

from app.approvals.content import hashed
from app.approvals.schemas import ATTACHMENT, Approvals, BlockStep, SignedContent
from app.cli.approvals import verify_report_command
from app.cli.connections import KEY
from app.identity.service import Changes
from app.reports.paper import Press
from app.reports.verification import NotReport, read_block, verify


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


@pytest.fixture(scope="module")
def design(room):
    """A released revision, and a later one that nobody has signed."""
    design = created(room.author, paper())
    signed(room, design)
    return patched(room.author, design, {"parameters": {"scale": "1.1"}})


@pytest.fixture(scope="module")
def printed(room, design):
    return pdf_of(room.author, design)


@pytest.fixture(scope="module")
def unsigned(room, design):
    """The report of the later revision."""
    return pdf_of(room.author, design, 2)


def pdf_of(http, design, number=1, **query):
    place = f"{API}/designs/{design['id']}/revisions/{number}/report.pdf"
    answer = http.get(place, params=query, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text[:300]
    return answer.content


def text_of(pdf):
    pages = pypdf.PdfReader(io.BytesIO(pdf)).pages
    return " ".join("\n".join(page.extract_text() for page in pages).split())


def approvals_of(http, design, number=1):
    place = f"{API}/designs/{design['id']}/revisions/{number}/approvals"
    return Approvals.model_validate(http.get(place).json())


def failures(pdf, approvals, printed):
    return [line.words for line in verify(pdf, read_block(pdf), approvals, printed) if not line.holds]


def with_block(pdf, change):
    """The same pages with another attachment."""
    block = change(read_block(pdf))
    writer = pypdf.PdfWriter(clone_from=io.BytesIO(pdf))
    writer.root_object["/Names"].get_object().pop("/EmbeddedFiles", None)
    writer.add_attachment(ATTACHMENT, block.model_dump_json().encode())
    return written(writer)


def written(writer):
    out = io.BytesIO()
    writer.write(out)
    return out.getvalue()


def test_a_released_report_says_who_signed_when_and_the_digests(room, design, printed):
    said, steps = text_of(printed), approvals_of(room.author, design).steps
    for one in steps:
        assert f"{one.name} {one.at[:10]} {one.at[11:19]} UTC {one.digest[:32]} {one.digest[32:]}" in said
    assert "Released." in said
    assert [one.digest for one in read_block(printed).steps] == [one.digest for one in steps]
    html = room.author.get(f"{API}/designs/{design['id']}/revisions/1/report.html").text
    assert all(one.digest in html for one in steps)


@pytest.mark.slow
def test_the_head_of_a_report_names_the_author_whether_or_not_anything_is_signed(
    room, team, design, printed, unsigned
):
    """In a signed one by the name of that time, so that it stays the same."""
    identity, id = team.identity, team.principals["author"]
    place = f"{API}/designs/{design['id']}/revisions"
    assert "Author author" in text_of(unsigned)
    assert pypdf.PdfReader(io.BytesIO(printed)).metadata.author == "author"
    identity.change(id, Changes(name="renamed"))
    try:
        assert "Author</dt><dd><bdi>renamed" in room.author.get(f"{place}/2/report.html").text
        assert pdf_of(room.author, design) == printed
    finally:
        identity.change(id, Changes(name="author"))


def test_where_nobody_is_asked_for_a_key_a_report_names_no_author(http):
    alone = created(http, paper(name="of nobody"))
    page = http.get(f"{API}/designs/{alone['id']}/report.html").text
    assert "<dt>Author</dt>" not in page


@pytest.mark.slow
def test_an_unreleased_report_says_so(unsigned):
    said = text_of(unsigned)
    assert "Not released." in said
    assert "Checked: name, date, signature" in said


def test_a_released_report_is_the_same_whatever_follows(room, design, printed):
    assert pdf_of(room.author, design) == printed
    assert failures(printed, approvals_of(room.author, design), printed) == []


@pytest.mark.slow
def test_a_changed_page_is_named(room, design, printed, unsigned):
    pages = pypdf.PdfWriter(clone_from=io.BytesIO(unsigned))
    pages.root_object["/Names"].get_object().pop("/EmbeddedFiles", None)
    pages.add_attachment(ATTACHMENT, read_block(printed).model_dump_json().encode())
    failed = failures(written(pages), approvals_of(room.author, design), printed)
    assert failed
    assert failed[0].startswith("the service has not printed this file")
    assert all(line.startswith("the text differs: the file says") for line in failed[1:])


@pytest.mark.slow
def test_other_bytes_of_the_same_text_are_named(room, design, printed):
    same = with_block(printed, lambda block: block)
    failed = failures(same, approvals_of(room.author, design), printed)
    assert failed[1:] == ["the text is the same as today; pictures, fonts or hidden parts differ"]


@pytest.mark.slow
def test_an_unknown_digest_and_another_name_are_named(room, design, printed):
    approvals = approvals_of(room.author, design)

    def forged(**change):
        def changed(block):
            first, *rest = block.steps
            return block.model_copy(update={"steps": [first.model_copy(update=change), *rest]})

        return failures(with_block(printed, changed), approvals, printed)

    assert f"calculated: digest {'0' * 16}… is unknown" in forged(digest="0" * 64)[0]
    assert "calculated: the file says Eve at" in forged(name="Eve")[0]


@pytest.mark.slow
def test_the_report_of_another_revision_is_named(room, design, printed, unsigned):
    other = with_block(printed, lambda block: block.model_copy(update={"revision": 2}))
    failed = failures(other, approvals_of(room.author, design, 2), unsigned)
    assert "calculated: the service knows no such step of this revision" in failed
    assert "not released: the revision is unsigned" in failed


def test_rows_that_were_changed_are_named(room, design, printed):
    approvals = approvals_of(room.author, design)
    present = approvals.present.model_copy(update={"document": "0" * 64})
    failed = failures(printed, approvals.model_copy(update={"present": present}), printed)
    assert "calculated: the revision's document: not as signed" in failed[0]
    first, second, third = approvals.steps
    other = second.model_copy(update={"content": second.content.model_copy(update={"title": "another"})})
    failed = failures(printed, approvals.model_copy(update={"steps": [first, other, third]}), printed)
    assert failed == ["checked: the signed content was changed: it does not hash to the digest"]


@pytest.mark.slow
def test_a_report_printed_before_the_release_and_a_withdrawn_one_are_named(room):
    fresh = created(room.author, paper(name="early"))
    signing(room.author, fresh, "calculated")
    early = pdf_of(room.author, fresh)
    signing(room.checker, fresh, "checked")
    signing(room.releaser, fresh, "released")
    failed = failures(early, approvals_of(room.author, fresh), pdf_of(room.author, fresh))
    assert "printed when the revision was calculated; it is released now: print it again" in failed
    final = pdf_of(room.author, fresh)
    signing(room.checker, fresh, "withdrawn", reason="the load was wrong")
    failed = failures(final, approvals_of(room.author, fresh), pdf_of(room.author, fresh))
    assert any(line.startswith("withdrawn by checker") and "the load was wrong" in line for line in failed)


def test_what_is_no_report_is_refused(room):
    with pytest.raises(NotReport, match="cannot be read as PDF"):
        read_block(b"%PDF-1.7 nothing")
    writer = pypdf.PdfWriter()
    writer.add_blank_page(100, 100)
    with pytest.raises(NotReport, match=r"has no attachment approval\.json"):
        read_block(written(writer))


@pytest.mark.slow
def test_the_command_verifies_against_a_service(team, design, printed, tmp_path):
    file = tmp_path / "report.pdf"
    file.write_bytes(printed)
    environment = {"CRANKWRIGHT_KEY": team.keys["viewer"]}
    run = CliRunner().invoke(verify_report_command, [str(file), "--url", team.server.url], env=environment)
    assert run.exit_code == 0, run.output
    assert "holds  every byte is that of the report as the service printed it, 20" in run.output
    file.write_bytes(with_block(printed, lambda block: block.model_copy(update={"revision": 2})))
    run = CliRunner().invoke(verify_report_command, [str(file), "--url", team.server.url], env=environment)
    assert run.exit_code == 1
    assert "FAILS  not released" in run.output


@pytest.mark.slow
def test_a_report_verifies_after_an_upgrade_that_prints_other_pages(
    team, design, printed, tmp_path, monkeypatch
):
    """The service recognises the file, because it recorded each print of the signed revision."""
    file = tmp_path / "report.pdf"
    file.write_bytes(printed)
    monkeypatch.setattr(Press, "print", lambda *_: pdf_with("another layout"))
    environment = {KEY: team.keys["viewer"]}
    run = CliRunner().invoke(verify_report_command, [str(file), "--url", team.server.url], env=environment)
    assert run.exit_code == 0, run.output
    assert "as the service printed it" in run.output
    with team.http("viewer") as http:
        assert pdf_of(http, design) == pdf_with("another layout")


def pdf_with(words):
    writer = pypdf.PdfWriter()
    writer.add_blank_page(100, 100)
    writer.add_metadata({"/Title": words})
    return written(writer)


@pytest.mark.slow
def test_a_print_that_nobody_recorded_is_compared_by_its_numbers(room, design, printed, unsigned):
    """Steps from before prints were recorded lack the mark; the digests are made anew for them here."""
    now = approvals_of(room.author, design)
    steps, previous = [], None
    for one in now.steps:
        raw = {**one.content.plain(), "previous": previous}
        del raw["prints"]
        content = SignedContent.model_validate(raw)
        previous = hashed(content)
        steps.append(one.model_copy(update={"content": content, "digest": previous}))
    old = now.model_copy(update={"steps": steps, "prints": []})

    def signed_by_old(pdf):
        update = {"steps": [BlockStep(step=s.step, name=s.name, at=s.at, digest=s.digest) for s in steps]}
        return with_block(pdf, lambda _: read_block(printed).model_copy(update=update))

    right, wrong = signed_by_old(printed), signed_by_old(unsigned)
    lines = list(verify(right, read_block(right), old, printed))
    assert all(line.holds for line in lines)
    assert "printed by another version" in lines[-1].words
    assert "numbers that the report of this revision has not" in failures(wrong, old, printed)[0]


@pytest.fixture
def verified(team, tmp_path):
    """Runs the command on bytes; nothing but a sentence may come of it."""

    def run(pdf, url=team.server.url, key=team.keys["viewer"]):
        file = tmp_path / "report.pdf"
        file.write_bytes(pdf)
        done = CliRunner().invoke(verify_report_command, [str(file), "--url", url], env={KEY: key})
        assert isinstance(done.exception, SystemExit), done.exception
        assert done.exit_code != 0
        return done.output

    return run


def test_reports_of_another_service_and_files_that_are_none_end_in_a_sentence(verified, printed):
    foreign = with_block(printed, lambda block: block.model_copy(update={"design": "0" * 24}))
    assert "Error: 404" in verified(foreign) or "no design" in verified(foreign)
    for wrong in (b"", b"\0" * 1000, printed[: len(printed) // 2], printed[:20] + b"\xff" * 5000):
        assert "Error: " in verified(wrong)


@pytest.mark.slow
def test_a_block_with_another_place_for_a_design_is_refused_before_anything_is_asked(verified, printed):
    """It comes from whoever made the file, and becomes part of an address."""
    for design in ("../principals", "a/b?c=d", "\x1b[31m", "", "x" * 5000):
        said = verified(with_block(printed, lambda block, d=design: block.model_copy(update={"design": d})))
        assert "its attachment approval.json is wrong: design" in said
        assert "\x1b" not in said


@pytest.mark.slow
def test_a_service_that_is_away_or_does_not_know_the_key_is_named(verified, printed):
    assert "no service answers at http://127.0.0.1:1" in verified(printed, url="http://127.0.0.1:1")
    assert "Error: " in verified(printed, key="cw_aaaaaaaaaa_" + "b" * 43)


@pytest.mark.slow
def test_signers_whose_accounts_one_administrator_created_are_shown(team, room):
    """The operator created the others by command."""
    pair = []
    for name in ("Ada of Eve", "Ben of Eve"):
        made = room.admin.post(f"{API}/principals", json={"name": name, "roles": ["checker"]}).json()
        key = room.admin.post(f"{API}/principals/{made['id']}/keys", json={"name": "test"}).json()["key"]
        pair.append(httpx.Client(base_url=room.admin.base_url, headers={"Authorization": f"Bearer {key}"}))
    design = created(room.author, paper(name="by two of one"))
    signing(room.author, design, "calculated")
    with pair[0] as first, pair[1] as second:
        signing(first, design, "checked")
        assert "created the accounts" not in text_of(pdf_of(room.author, design))
        signing(second, design, "released")
    assert "Released; admin created the accounts of Ada of Eve and Ben of Eve." in text_of(
        pdf_of(room.author, design)
    )
