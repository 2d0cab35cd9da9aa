"""Settings in the way of Kratos."""

import pickle

import pytest

from zelus import Parameters

TEXT = """{ // comments are left out
    "name": "a // b", "count": 3, "length": 2.5, "on": true, /* here
    too */ "list": [1.0, 2, 3], "rows": [[1, 2], [3, 4]], "inner": {"words": ["x", "y"], "nothing": null}
}"""


def test_values_are_read_by_type():
    own = Parameters(TEXT)
    assert own["name"].GetString() == "a // b" and own["count"].GetInt() == 3 and own["on"].GetBool()
    assert own["length"].GetDouble() == 2.5 and own["count"].GetDouble() == 3.0
    assert own["list"].GetVector().tolist() == [1, 2, 3] and own["rows"].GetMatrix().shape == (2, 2)
    assert own["inner"]["words"].GetStringArray() == ["x", "y"] and own["inner"]["nothing"].IsNull()
    assert [item.GetDouble() for item in own["list"]] == [1, 2, 3] and own["list"].size() == 3
    for key, method in [("name", "GetInt"), ("length", "GetInt"), ("on", "GetDouble"), ("count", "GetBool")]:
        with pytest.raises(TypeError):
            getattr(own[key], method)()
    with pytest.raises(KeyError, match="count"):
        own["cuont"]


def test_members_share_their_values():
    own = Parameters(TEXT)
    own["inner"]["words"][0].SetString("z")
    own["inner"].AddEmptyValue("new").SetInt(4)
    own["list"].Append(5)
    own["count"].SetDouble(1)
    copy = own.Clone()
    copy["count"].SetInt(7)
    assert own["inner"]["words"].GetStringArray() == ["z", "y"] and own["inner"]["new"].GetInt() == 4
    assert own["list"].size() == 4 and own["count"].IsDouble() and own["count"].GetDouble() == 1
    assert own.RemoveValue("rows") and not own.RemoveValue("rows") and not own.Has("rows")
    assert pickle.loads(pickle.dumps(own)).IsEquivalentTo(own)


def test_defaults_are_checked_and_taken():
    defaults = Parameters('{"a": 1, "b": {"c": "x", "d": [1]}, "e": 2.5}')
    own = Parameters('{"b": {"c": "y"}, "e": 3}')
    own.RecursivelyValidateAndAssignDefaults(defaults)
    assert own["a"].GetInt() == 1 and own["b"]["c"].GetString() == "y" and own["b"]["d"].size() == 1
    own["b"]["d"].Append(2)
    assert defaults["b"]["d"].size() == 1
    with pytest.raises(RuntimeError, match="f"):
        Parameters('{"f": 1}').ValidateAndAssignDefaults(defaults)
    with pytest.raises(RuntimeError, match="like 1"):
        Parameters('{"a": "one"}').ValidateAndAssignDefaults(defaults)
