"""The migrations create the schema that the tables declare."""

import pytest
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from sqlalchemy import inspect, text

from app.storage.engines import migrating_engine, writing_engine
from app.storage.errors import DatabaseBeforeRelease, DatabaseNewer
from app.storage.migrations import migrate
from app.storage.tables import Base


@pytest.fixture
def url(tmp_path):
    return f"sqlite:///{tmp_path}/test.sqlite"


def differences(engine):
    with engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        return compare_metadata(context, Base.metadata)


def test_migrated_schema_is_the_declared_one(url):
    migrate(url)
    engine = migrating_engine(url)
    assert differences(engine) == []
    engine.dispose()


def test_comparison_sees_a_missing_index(url):
    migrate(url)
    engine = writing_engine(url)
    with engine.begin() as connection:
        connection.execute(text("drop index ix_job_client_state"))
    assert [change[0] for change in differences(engine)] == ["add_index"]
    engine.dispose()


def constraint_names(engine):
    inspector = inspect(engine)
    tables = sorted(Base.metadata.tables)
    primary = [inspector.get_pk_constraint(table)["name"] for table in tables]
    return primary + [key["name"] for table in tables for key in inspector.get_foreign_keys(table)]


def test_constraints_have_the_names_of_the_convention(url, tmp_path):
    migrate(url)
    migrated, declared = migrating_engine(url), migrating_engine(f"sqlite:///{tmp_path}/declared.sqlite")
    Base.metadata.create_all(declared)
    assert constraint_names(migrated) == constraint_names(declared)
    migrated.dispose()
    declared.dispose()


def test_migrating_again_changes_nothing(url):
    migrate(url)
    migrate(url)
    engine = migrating_engine(url)
    assert differences(engine) == []
    engine.dispose()


def test_database_of_a_newer_program_is_refused(url):
    migrate(url)
    engine = writing_engine(url)
    with engine.begin() as connection:
        connection.execute(text("update alembic_version set version_num = '9999'"))
    engine.dispose()
    with pytest.raises(DatabaseNewer, match="9999"):
        migrate(url)


@pytest.mark.parametrize("schema", ["0001", "0009"])
def test_database_of_before_the_first_release_is_refused_by_name(url, schema):
    engine = writing_engine(url)
    with engine.begin() as connection:
        connection.execute(text("create table alembic_version (version_num varchar(32) not null)"))
        connection.execute(text(f"insert into alembic_version values ('{schema}')"))
    with pytest.raises(DatabaseBeforeRelease, match=f"schema {schema}, from before the first release"):
        migrate(url)
    assert inspect(engine).get_table_names() == ["alembic_version"]
    engine.dispose()
